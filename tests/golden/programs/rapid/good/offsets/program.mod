MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num n;
  VAR robtarget p2;
  PROC main()
    MoveL Offs(p1,10,-20,30),v100,fine,tool0;
    MoveL Offs(Offs(p1,0,0,50),0,0,50),v100,fine,tool0;
    n:=7;
    MoveL Offs(p1,0,0,n*10),v100,fine,tool0;
    p2:=Offs(p1,1,2,3);
    MoveL p2,v100,fine,tool0;
  ENDPROC
ENDMODULE
