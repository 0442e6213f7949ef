MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget home:=[[0,-30,30,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveAbsJ home\NoEOffs,v100,fine,tool0;
    MoveL\Conc,p1,v100,fine,tool0;
    MoveL p1\ID:=10,v100\V:=50,z10\Inpos:=inpos50,tool0\Corr;
    WaitTime\InPos,0.5;
    SetDO\SDelay:=0.2,do1,1;
    WaitDI di1,1\Visualize;
    Stop\NoRegain;
    MoveL p1,v100,fine,tool0\;
  ENDPROC
ENDMODULE
