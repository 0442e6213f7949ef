MODULE M
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  PERS wobjdata table:=[FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveL p1,v100,fine,tGrip;
    MoveL p1,v100,fine,tGrip\WObj:=table;
    MoveL p1,v100,fine,tOther;
    MoveL p1,v100,fine,tool0\WObj:=wOther;
  ENDPROC
ENDMODULE
