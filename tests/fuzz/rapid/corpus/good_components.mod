MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget home:=[[0,-30,30,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget p2:=p1;
  PERS jointtarget j:=[[0,-30,30,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    p2.trans.z:=p2.trans.z+50;
    p2.trans.x:=p1.trans.y*2;
    MoveL p2,v100,fine,tool0;
    j.robax.rax_3:=-j.robax.rax_2;
    MoveAbsJ j,v7000,fine,tool0;
    IF home.robax.rax_5=60 Set do1;
  ENDPROC
ENDMODULE
